(** * Many degrees of freedom: the signs of two matrices decide

    H = [[A, B], [C, D]] in n x n blocks is the propagator over half a period in mass-weighted coordinates; it is symplectic. Q = H' H with
    H' = [[D^H, B^H], [C^H, A^H]] is the propagator over the whole palindromic period. The two Hermitian matrices

        P = A B^H,        R = - C D^H

    play the role of the products of signs for one degree of freedom: where both are positive definite (or both negative definite), every
    multiplier of Q lies on the unit circle, away from 1 and -1; where one of them is definite, every multiplier is real or on the circle.

    Words: adj M == the conjugate transpose of M; form M u == u M u^H, a number; definite M == the form of M is positive off 0;
    symplectic A B C D == the three relations that say so; period A B C D == Q; multiplier Q z == z is an eigenvalue of Q.
    The scalars are any algebraically closed field with a conjugation, so real matrices and their complex multipliers are covered. *)

Set Warnings "-notation-overridden,-ambiguous-paths".
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Words.
Variable F : numClosedFieldType.

Definition adj m n (M : 'M[F]_(m, n)) : 'M[F]_(n, m) := map_mx conjC M^T.
Definition form n (M : 'M[F]_n) (u : 'rV[F]_n) : F := (u *m M *m adj u) 0 0.
Definition definite n (M : 'M[F]_n) : Prop := forall u, u != 0 -> 0 < form M u.

Definition symplectic n (A B C D : 'M[F]_n) : Prop :=
  [/\ A *m adj B = B *m adj A, C *m adj D = D *m adj C & A *m adj D - B *m adj C = 1%:M].

Definition period n (A B C D : 'M[F]_n) : 'M[F]_(n + n) :=
  block_mx (adj D) (adj B) (adj C) (adj A) *m block_mx A B C D.

Definition multiplier n (Q : 'M[F]_n) (z : F) : Prop := exists2 x : 'cV[F]_n, x != 0 & Q *m x = z *: x.

End Words.

Section Proofs.
Variable F : numClosedFieldType.

Lemma adjM m n p (X : 'M[F]_(m, n)) (Y : 'M[F]_(n, p)) : adj (X *m Y) = adj Y *m adj X.
Proof. by rewrite /adj trmx_mul map_mxM. Qed.

Lemma adjK m n (X : 'M[F]_(m, n)) : adj (adj X) = X.
Proof. by apply/matrixP=> i j; rewrite !mxE conjCK. Qed.

Lemma adjZ m n (z : F) (X : 'M[F]_(m, n)) : adj (z *: X) = z^* *: adj X.
Proof. by apply/matrixP=> i j; rewrite !mxE rmorphM. Qed.

Lemma adjD m n (X Y : 'M[F]_(m, n)) : adj (X + Y) = adj X + adj Y.
Proof. by apply/matrixP=> i j; rewrite !mxE rmorphD. Qed.

Lemma adjN m n (X : 'M[F]_(m, n)) : adj (- X) = - adj X.
Proof. by apply/matrixP=> i j; rewrite !mxE rmorphN. Qed.

Lemma adj1 n : adj (1%:M : 'M[F]_n) = 1%:M.
Proof. by apply/matrixP=> i j; rewrite !mxE eq_sym conjC_nat. Qed.

Lemma adj_eq0 m n (X : 'M[F]_(m, n)) : (adj X == 0) = (X == 0).
Proof.
apply/eqP/eqP=> [h|->]; last by apply/matrixP=> i j; rewrite !mxE conjC0.
by rewrite -[X]adjK h; apply/matrixP=> i j; rewrite !mxE conjC0.
Qed.

(** A definite matrix is invertible. *)
Lemma definite_unit n (M : 'M[F]_n) : definite M -> M \in unitmx.
Proof.
move=> pos; rewrite -row_free_unit; apply/row_freeP.
case: (boolP (row_free M)) => [/row_freeP //|]; rewrite -kermx_eq0 => /rowV0Pn [u].
move/sub_kermxP=> uM u0; move: (pos u u0).
by rewrite /form uM mul0mx mxE ltxx.
Qed.

(** The form of a Hermitian matrix is real. *)
Lemma form_real n (M : 'M[F]_n) u : adj M = M -> form M u \is Num.real.
Proof.
move=> herm; apply/CrealP; rewrite /form.
have -> : ((u *m M *m adj u) 0 0)^* = (adj (u *m M *m adj u)) 0 0 by rewrite !mxE.
by rewrite !adjM adjK herm mulmxA.
Qed.

Section Half.
Variables (n : nat) (A B C D : 'M[F]_n).
Hypothesis H_symplectic : symplectic A B C D.

Let P : 'M[F]_n := A *m adj B.
Let R : 'M[F]_n := - (C *m adj D).

Lemma P_hermitian : adj P = P.
Proof. by case: H_symplectic => ab _ _; rewrite /P adjM adjK ab. Qed.

Lemma R_hermitian : adj R = R.
Proof. by case: H_symplectic => _ cd _; rewrite /R adjN adjM adjK cd. Qed.

(** The inverse of H, and with it the relations between the columns. *)
Lemma inverse :
  block_mx A B C D *m block_mx (adj D) (- adj B) (- adj C) (adj A) = 1%:M.
Proof.
case: H_symplectic => ab cd ad.
have da : D *m adj A - C *m adj B = 1%:M.
  by rewrite -[LHS]adjK adjD adjN !adjM !adjK ad adj1.
rewrite mulmx_block !mulmxN ad ab cd (addrC (- (C *m _))) da !subrr addNr.
by rewrite [RHS]scalar_mx_block.
Qed.

Lemma columns :
  [/\ adj D *m A - adj B *m C = 1%:M, adj D *m B = adj B *m D,
      adj A *m C = adj C *m A & adj A *m D - adj C *m B = 1%:M].
Proof.
have := mulmx1C inverse; rewrite mulmx_block !mulNmx scalar_mx_block.
case/eq_block_mx => da db ca ad; split=> //.
- by apply/eqP; rewrite -subr_eq0 db.
- by apply/eqP; rewrite -subr_eq0 addrC ca.
by rewrite addrC.
Qed.

(** Let u be a left eigenvector of C B^H; then the forms of R and of P are tied by the eigenvalue. *)
Lemma tied u mu v :
  P \in unitmx -> u *m (C *m adj B) = mu *: u -> u = v *m P ->
  form R u = - (mu * (1 + mu^* )) * form P v.
Proof.
case: H_symplectic => ab cd ad Pu eig uv.
have Bu : adj B \in unitmx by move: Pu; rewrite /P unitmx_mul => /andP[].
have Au : adj A \in unitmx by move: Pu; rewrite /P ab unitmx_mul => /andP[].
have da : D *m adj A - C *m adj B = 1%:M.
  by rewrite -[LHS]adjK adjD adjN !adjM !adjK ad adj1.
have uC : u *m C = mu *: (v *m A).
  apply: (can_inj (mulmxK Bu)).
  by rewrite -scalemxAl -!mulmxA -/P -uv -eig.
have uD : u *m D = (1 + mu) *: (v *m B).
  apply: (can_inj (mulmxK Au)).
  rewrite -scalemxAl -!mulmxA -ab -/P -uv.
  have -> : D *m adj A = 1%:M + C *m adj B by rewrite -da subrK.
  by rewrite mulmxDr mulmx1 eig scalerDl scale1r.
have -> : form R u = - ((u *m C) *m adj (u *m D)) 0 0.
  by rewrite /form /R mulmxN mulNmx mxE adjM !mulmxA.
rewrite uC uD adjZ -scalemxAl -scalemxAr scalerA mxE rmorphD rmorph1 adjM.
by rewrite /form /P !mulmxA mulNr.
Qed.

(** One definite form: every eigenvalue is real. *)
Lemma left_real (u : 'rV[F]_n) mu :
  definite P -> u != 0 -> u *m (C *m adj B) = mu *: u -> mu \is Num.real.
Proof.
move=> Ppos u0 eig; have Pu := definite_unit Ppos.
pose v := u *m invmx P; have uv : u = v *m P by rewrite mulmxKV.
have v0 : v != 0 by apply: contraNneq u0 => v0; rewrite uv v0 mul0mx.
have Pv := Ppos v v0; have := form_real u R_hermitian.
rewrite -/R (tied Pu eig uv) mulNr rpredN => Rreal.
have : mu * (1 + mu^* ) \is Num.real.
  by rewrite -[mu * _](mulfK (lt0r_neq0 Pv)) rpredM // rpredV gtr0_real.
rewrite mulrDr mulr1 -normCK => h.
by rewrite -[mu](addrK (`|mu| ^+ 2)) rpredB // rpredX // normr_real.
Qed.

(** Both definite: every eigenvalue lies strictly between -1 and 0. *)
Lemma left_between (u : 'rV[F]_n) mu :
  definite P -> definite R -> u != 0 -> u *m (C *m adj B) = mu *: u -> -1 < mu < 0.
Proof.
move=> Ppos Rpos u0 eig; have Pu := definite_unit Ppos.
pose v := u *m invmx P; have uv : u = v *m P by rewrite mulmxKV.
have v0 : v != 0 by apply: contraNneq u0 => v0; rewrite uv v0 mul0mx.
have mur := left_real Ppos u0 eig.
have := Rpos u u0; rewrite -/R (tied Pu eig uv) pmulr_lgt0; last exact: Ppos.
rewrite oppr_gt0 (CrealP mur) => neg.
have mu1 : 1 + mu \is Num.real by rewrite rpredD ?rpred1.
have mu_neg : mu < 0.
  rewrite real_ltNge ?rpred0 //; apply/negP => mu0.
  by have := lt_geF neg; rewrite mulr_ge0 // addr_ge0 ?ler01.
by move: neg; rewrite nmulr_rlt0 // mu_neg andbT -ltr_subl_addl sub0r.
Qed.

(** A right eigenvector of C B^H gives a left one. *)
Lemma right_left (w : 'cV[F]_n) mu :
  P \in unitmx -> w != 0 -> (C *m adj B) *m w = mu *: w ->
  adj (P *m w) != 0 /\ adj (P *m w) *m (C *m adj B) = mu^* *: adj (P *m w).
Proof.
case: H_symplectic (columns) => ab cd ad [da _ _ _] Pu w0 eig; split.
  by rewrite adj_eq0; apply: contraNneq w0 => Pw; rewrite -[w](mulKmx Pu) Pw mulmx0.
have bc : B *m adj C = A *m adj D - 1%:M by rewrite -ad opprB addrC subrK.
have bc' : adj B *m C = adj D *m A - 1%:M by rewrite -da opprB addrC subrK.
have herm : adj (P *m (C *m adj B)) = P *m (C *m adj B).
  rewrite (adjM P) P_hermitian (adjM C) adjK bc mulmxBl mul1mx /P.
  by rewrite -!mulmxA (mulmxA (adj B)) bc' mulmxBl mul1mx mulmxBr !mulmxA.
have pw : adj (P *m w) = adj w *m P by rewrite (adjM P) P_hermitian.
have -> : adj (P *m w) *m (C *m adj B) = adj ((P *m (C *m adj B)) *m w).
  by rewrite (adjM (P *m (C *m adj B)) w) herm pw -mulmxA.
by rewrite -mulmxA eig -scalemxAr adjZ.
Qed.

(** The period backwards in time is the period with B and C of the other sign. *)
Let back : 'M[F]_(n + n) :=
  block_mx (adj D) (- adj B) (- adj C) (adj A) *m block_mx A (- B) (- C) D.

Lemma back_period : back *m period A B C D = 1%:M.
Proof.
case: H_symplectic => ab cd ad.
have da : D *m adj A - C *m adj B = 1%:M.
  by rewrite -[LHS]adjK adjD adjN !adjM !adjK ad adj1.
have mid : block_mx A (- B) (- C) D *m block_mx (adj D) (adj B) (adj C) (adj A) = 1%:M.
  rewrite mulmx_block !mulNmx ad ab cd (addrC (- (C *m adj B))) da subrr addNr.
  by rewrite [RHS]scalar_mx_block.
by rewrite /back /period mulmxA -(mulmxA _ (block_mx A (- B) (- C) D)) mid mulmx1 (mulmx1C inverse).
Qed.

(** An eigenvector of Q falls into eigenvectors of B^H C and of C^H B. *)
Lemma share (a b k : 'M[F]_n) (y z : 'cV[F]_n) l l' :
  a = 1%:M + k *+ 2 -> a *m y + b *m z = l *: y -> a *m y - b *m z = l' *: y ->
  k *m y = ((l + l' - 2%:R) / 4%:R) *: y.
Proof.
move=> ak up down.
have four : (4%:R : F) != 0 by rewrite pnatr_eq0.
have ay : a *m y *+ 2 = (l + l') *: y by rewrite scalerDl -up -down addrACA subrr addr0 mulr2n.
apply: (scalerI four); rewrite scalerA mulrCA divff // mulr1 scalerBl -ay ak.
have ky : (k *+ 2) *m y = k *m y *+ 2 by rewrite !mulr2n mulmxDl.
by rewrite mulmxDl mul1mx mulrnDl ky !scaler_nat addrAC subrr add0r -mulrnA.
Qed.

Lemma halves (y z : 'cV[F]_n) l :
  period A B C D *m col_mx y z = l *: col_mx y z -> col_mx y z != 0 ->
  let mu := (l + l^-1 - 2%:R) / 4%:R in
  [/\ l != 0, adj B *m C *m y = mu *: y & adj C *m B *m z = mu *: z].
Proof.
move=> eig x0 mu.
have l0 : l != 0.
  apply: contraNneq x0 => l0; have := congr1 (mulmx back) eig.
  by rewrite l0 scale0r mulmx0 mulmxA back_period mul1mx => ->.
have geb : back *m col_mx y z = l^-1 *: col_mx y z.
  apply: (scalerI l0); rewrite scalerA mulfV // scale1r scalemxAr -eig mulmxA back_period.
  by rewrite mul1mx.
case: columns => da _ _ ad.
have da' : adj D *m A = 1%:M + adj B *m C by rewrite -da subrK.
have ad' : adj A *m D = 1%:M + adj C *m B by rewrite -ad subrK.
move: eig; rewrite /period mulmx_block mul_block_col scale_col_mx => /eq_col_mx[up up'].
move: geb; rewrite /back mulmx_block mul_block_col scale_col_mx => /eq_col_mx[down down'].
split=> //.
- apply: (share _ up); first by rewrite da' -addrA mulr2n.
  by rewrite -down !mulmxN !mulNmx opprK -opprD mulNmx.
- apply: (@share (adj C *m B + adj A *m D) (adj C *m A + adj A *m C) _ z y l l^-1).
  + by rewrite ad' addrCA mulr2n.
  + by rewrite addrC up'.
  + by rewrite -down' !mulmxN !mulNmx opprK addrC -opprD mulNmx.
Qed.

(** So mu is an eigenvalue of C B^H on the left, or its conjugate is. *)
Lemma multiplier_left l :
  P \in unitmx -> multiplier (period A B C D) l ->
  l != 0 /\ exists2 u : 'rV[F]_n, u != 0 & u *m (C *m adj B) = ((l + l^-1 - 2%:R) / 4%:R)^* *: u.
Proof.
move=> Pu [x x0]; rewrite -[x]vsubmxK in x0 *; move: (usubmx x) (dsubmx x) x0 => y z x0 eig.
have [l0 top bottom] := halves eig x0; split=> //.
have Bu : adj B \in unitmx by move: Pu; rewrite /P unitmx_mul => /andP[].
have [y0|y0] := eqVneq y 0; last first.
  pose w := invmx (adj B) *m y.
  have wy : y = adj B *m w by rewrite mulKVmx.
  have w0 : w != 0 by apply: contraNneq y0 => w0; rewrite wy w0 mulmx0.
  have eigw : (C *m adj B) *m w = ((l + l^-1 - 2%:R) / 4%:R) *: w.
    apply: (can_inj (mulKmx Bu)); rewrite -scalemxAr -wy -top -!mulmxA -wy.
    by [].
  by have [u0 eigu] := right_left Pu w0 eigw; exists (adj (P *m w)).
have z0 : z != 0 by apply: contraNneq x0 => ->; rewrite y0 col_mx0.
exists (adj z *m adj B).
  apply: contraNneq z0 => zB; rewrite -adj_eq0 -(mulmxK Bu (adj z)) zB mul0mx //.
have := congr1 (@adj F _ _) bottom; rewrite adjZ !adjM !adjK => eigz.
by rewrite !mulmxA -(mulmxA (adj z)) eigz scalemxAl.
Qed.
End Half.

Lemma two_numbers (x y : F) : x != 0 -> y != 0 ->
  (y + y^-1 - (x + x^-1)) * (x * y) = (y - x) * (x * y - 1).
Proof.
move=> x0 y0.
have e1 : y^-1 * (x * y) = x by rewrite mulrCA mulVf // mulr1.
have e2 : x^-1 * (x * y) = y by rewrite mulKf.
rewrite mulrBl (mulrDl y y^-1) (mulrDl x x^-1) e1 e2 mulrBr mulr1 mulrBl opprB.
by rewrite opprD addrACA.
Qed.

(** A number with l + 1/l real lies on the real line or on the unit circle. *)
Lemma real_or_circle (l : F) : l != 0 -> l + l^-1 \is Num.real -> l \is Num.real \/ `|l| = 1.
Proof.
move=> l0 /CrealP; rewrite rmorphD fmorphV => h.
have lc0 : l^* != 0 by rewrite conjC_eq0.
have := two_numbers l0 lc0; rewrite h subrr mul0r => /esym prod.
move/eqP: prod; rewrite mulf_eq0 => /orP[|]; rewrite subr_eq0 => /eqP e; [left|right].
  exact/CrealP.
by apply/eqP; rewrite -(@eqr_expn2 _ 2) ?normr_ge0 ?ler01 // normCK e expr1n.
Qed.

(** A real l with -2 < l + 1/l < 2 does not exist. *)
Lemma no_real (l : F) : l != 0 -> l \is Num.real -> -2%:R < l + l^-1 < 2%:R -> False.
Proof.
move=> l0 lr /andP[lo hi].
have e1 : (l + 1) ^+ 2 = (l + l^-1 + 2%:R) * l.
  by rewrite sqrrD1 (mulrDl (l + l^-1)) (mulrDl l l^-1) mulVf // -expr2 mulr_natl addrAC.
have e2 : (l - 1) ^+ 2 = (l + l^-1 - 2%:R) * l.
  by rewrite sqrrB1 mulrBl (mulrDl l l^-1) mulVf // -expr2 mulr_natl addrAC.
have up : 0 <= l.
  have := @real_exprn_even_ge0 _ 2 (l + 1) (rpredD lr (rpred1 _)) isT.
  by rewrite e1 pmulr_rge0 // -ltr_subl_addr sub0r.
have down : l <= 0.
  have := @real_exprn_even_ge0 _ 2 (l - 1) (rpredB lr (rpred1 _)) isT.
  by rewrite e2 nmulr_rge0 // subr_lt0.
by move: l0; rewrite (@le_anti _ _ l 0) ?eqxx // up down.
Qed.

(** * The theorems *)

(** Both forms definite: every multiplier lies on the unit circle, and neither 1 nor -1 is one. *)
Theorem both_definite n (A B C D : 'M[F]_n) l :
  symplectic A B C D -> definite (A *m adj B) -> definite (- (C *m adj D)) ->
  multiplier (period A B C D) l -> [/\ `|l| = 1, l != 1 & l != -1].
Proof.
move=> sym Ppos Rpos mult.
have [l0 [u u0 eig]] := multiplier_left sym (definite_unit Ppos) mult.
have /andP[lo hi] := left_between sym Ppos Rpos u0 eig.
have real : ((l + l^-1 - 2%:R) / 4%:R)^* = (l + l^-1 - 2%:R) / 4%:R.
  by rewrite -[RHS]conjCK (CrealP (left_real sym Ppos u0 eig)).
move: lo hi; rewrite real => lo hi.
have four : 0 < (4%:R : F) by rewrite ltr0n.
have bounds : -2%:R < l + l^-1 < 2%:R.
  move: lo hi; rewrite ltr_pdivl_mulr // ltr_pdivr_mulr // mul0r subr_lt0 => lo ->.
  rewrite andbT; move: lo; rewrite ltr_subr_addr; congr (_ < _).
  by rewrite mulN1r -[4%N]/(2 + 2)%N natrD opprD -addrA addNr addr0.
have sum_real : l + l^-1 \is Num.real.
  by case/andP: bounds => _ h; rewrite -[l + _](subrK 2%:R) rpredD ?realn // ltr0_real // subr_lt0.
case: (real_or_circle l0 sum_real) => [lr|l1]; first by case: (no_real l0 lr bounds).
split=> //; apply/negP => /eqP le; apply: (no_real l0 _ bounds); rewrite le ?rpred1 //.
by rewrite rpredN rpred1.
Qed.

(** One form definite: every multiplier is real or on the unit circle: no two modes collide. *)
Theorem one_definite n (A B C D : 'M[F]_n) l :
  symplectic A B C D -> definite (A *m adj B) ->
  multiplier (period A B C D) l -> l \is Num.real \/ `|l| = 1.
Proof.
move=> sym Ppos mult.
have [l0 [u u0 eig]] := multiplier_left sym (definite_unit Ppos) mult.
apply: real_or_circle => //.
have mur := left_real sym Ppos u0 eig.
have : (l + l^-1 - 2%:R) / 4%:R \is Num.real by rewrite -[_ / _]conjCK (CrealP mur).
move=> h; rewrite -[l + _](subrK 2%:R) -[l + _ - _](@divfK _ 4%:R) ?pnatr_eq0 //.
by apply: rpredD; [apply: rpredM => //|]; exact: realn.
Qed.

(** Time backwards: B and C change their signs, P and R too, and the multipliers stay. *)
Lemma reversed_symplectic n (A B C D : 'M[F]_n) : symplectic A B C D -> symplectic A (- B) (- C) D.
Proof.
case=> ab cd ad; split.
- by rewrite adjN mulmxN mulNmx ab.
- by rewrite adjN mulmxN mulNmx cd.
by rewrite adjN mulmxN mulNmx opprK.
Qed.

Lemma reversed_multiplier n (A B C D : 'M[F]_n) l :
  multiplier (period A B C D) l -> multiplier (period A (- B) (- C) D) l.
Proof.
case=> x x0 eig; rewrite -[x]vsubmxK in x0 eig; move: (usubmx x) (dsubmx x) x0 eig => y z x0 eig.
exists (col_mx y (- z)).
  apply: contraNneq x0 => /eqP; rewrite col_mx_eq0 oppr_eq0 => /andP[/eqP-> /eqP->].
  by rewrite col_mx0.
move: eig; rewrite /period !mulmx_block !mul_block_col !scale_col_mx => /eq_col_mx[<- up].
congr col_mx; first by rewrite !adjN !(mulmxN, mulNmx) !opprK -opprD mulNmx opprK.
by rewrite scalerN -up !adjN !(mulmxN, mulNmx) !opprK -opprD mulNmx -opprD.
Qed.

(** Both forms negative definite: the same. *)
Theorem both_negative n (A B C D : 'M[F]_n) l :
  symplectic A B C D -> definite (- (A *m adj B)) -> definite (C *m adj D) ->
  multiplier (period A B C D) l -> [/\ `|l| = 1, l != 1 & l != -1].
Proof.
move=> sym Pneg Rneg mult.
apply: (both_definite (reversed_symplectic sym) _ _ (reversed_multiplier mult)).
- by rewrite adjN mulmxN.
- by rewrite mulNmx opprK.
Qed.
End Proofs.
